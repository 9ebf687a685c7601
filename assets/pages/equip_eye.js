/* SPDX-License-Identifier: Apache-2.0 */
/* Where an eye may be: at a camera that the model calls so, from its seat and wheel, or before
   what was clicked. A start to look at and to move, no substitute for an eyellipse (SAE J941). */
var equipEye=(function(){
var view=equipView,data=view.data;
/* Behind a wheel's middle and above it: what the two shared cockpits and usual seats have. */
var BEHIND_M=0.6,ABOVE_M=0.3;
/* From a headrest to the eye: a head of 0.2 m and some room. */
var HEAD_M=0.25;
/* Eye height sitting: medians 0.79 m of men and 0.74 m of women (ANSUR 1988). */
var SITTING_M=0.75;
var WHEELS=[/steering.?wheel|lenkrad|volant/i,/steer|yoke|steuerhorn|lenk/i],
  NO_WHEEL=/column|cord|mount|rack|frame|s(ä|ae)ule|house|shaft|box|main|button|stalk/i;
var SEATS=/seat|sitz|si(e|è)ge/i,NO_SEAT=/mount|rail|belt|back.?seat|rear|rück|hinten|gurt/i;
var DRIVER=/driver|pilot|captain|fahrer|left|links|_l\b|\bl_/i;
var EYE=/eye|driver|pilot|captain|fahrer/i;

function boxOf(part){
  var low=[Infinity,Infinity,Infinity],high=[-Infinity,-Infinity,-Infinity];
  for(var i=3*part.first;i<3*(part.first+part.count);i++)
    for(var a=0;a<3;a++){
      var v=view.position[3*view.index[i]+a];
      low[a]=Math.min(low[a],v);
      high[a]=Math.max(high[a],v);
    }
  var size=[0,1,2].map(function(a){return high[a]-low[a];});
  return {part:part,low:low,high:high,size:size,
    middle:[0,1,2].map(function(a){return (low[a]+high[a])/2;})};
}
function named(part,words){return words.test(part.name)||words.test(part.mesh);}
function boxes(words,not){
  return data.parts.filter(function(part){
    return named(part,words)&&!named(part,not);
  }).map(boxOf);
}
function best(list,score){
  return list.reduce(function(a,b){return !a||score(b)>score(a)?b:a;},null);
}
/* Hand-sized, the driver's if one is called so. */
function findWheel(){
  for(var words of WHEELS){
    var list=boxes(words,NO_WHEEL).filter(function(b){
      var wide=Math.max(...b.size);
      return wide>0.15&&wide<0.7;
    });
    if(list.length)
      return best(list,function(b){return (named(b.part,DRIVER)?10:0)+Math.max(...b.size);});
  }
  return null;
}
function findSeat(wheel){
  var list=boxes(SEATS,NO_SEAT).filter(function(b){
    return b.size[1]>0.3&&b.size[1]<1.6&&Math.max(b.size[0],b.size[2])<1.6;
  });
  return best(list,function(b){
    if(!wheel)return named(b.part,DRIVER)?1:0;
    return -Math.hypot(b.middle[0]-wheel.middle[0],b.middle[2]-wheel.middle[2]);
  });
}
function axis(x,z){
  return Math.abs(x)>Math.abs(z)?[Math.sign(x),0,0]:[0,0,Math.sign(z)||-1];
}
/* Ahead of a seat alone is away from its back, where it is tall. */
function aheadOfSeat(seat){
  var sum=[0,0],count=0;
  for(var i=3*seat.part.first;i<3*(seat.part.first+seat.part.count);i++){
    var v=3*view.index[i];
    if(view.position[v+1]<seat.high[1]-0.25*seat.size[1])continue;
    sum[0]+=view.position[v]-seat.middle[0];
    sum[1]+=view.position[v+2]-seat.middle[2];
    count++;
  }
  return axis(-sum[0]/count,-sum[1]/count);
}
function fromWheel(wheel,seat){
  var d=seat?[wheel.middle[0]-seat.middle[0],wheel.middle[2]-seat.middle[2]]:[0,-1];
  var ahead=axis(d[0],d[1]),p=wheel.middle.slice();
  for(var a=0;a<3;a++)p[a]-=BEHIND_M*ahead[a];
  p[1]+=ABOVE_M;
  return {position:p,ahead:ahead,label:seat?'Seat and wheel':'Wheel',name:'driver eye',
    why:'0.6 m behind the middle of "'+wheel.part.name+'" and 0.3 m above it'+
      (seat?', ahead from "'+seat.part.name+'"':'')};
}
function fromSeat(seat){
  var ahead=aheadOfSeat(seat),p=seat.middle.slice(),long=Math.abs(ahead[0])*seat.size[0]+
    Math.abs(ahead[2])*seat.size[2];
  for(var a=0;a<3;a+=2)p[a]+=ahead[a]*(HEAD_M-long/2);
  p[1]=seat.high[1];
  return {position:p,ahead:ahead,label:'Seat',name:'driver eye',
    why:'level with the top of "'+seat.part.name+'", 0.25 m before its back'};
}
function fromCamera(camera){
  var a=camera.ahead;
  return {position:camera.position.slice(),ahead:axis(a[0],a[2]),gaze:a,
    label:'Camera '+camera.name,name:camera.name.replace(/[-_]/g,' '),
    why:'where the model\'s own camera "'+camera.name+'" is'};
}
/* The likeliest first. */
function proposals(){
  var list=[],wheel=findWheel(),seat=findSeat(wheel);
  data.cameras.forEach(function(c){
    if(c.perspective&&EYE.test(c.name))list.push(fromCamera(c));
  });
  if(wheel)list.push(fromWheel(wheel,seat));
  else if(seat)list.push(fromSeat(seat));
  return list;
}
/* A cushion is clicked from above, a headrest from ahead. */
function before(hit){
  var p=hit.point,n=hit.normal,level=Math.hypot(n.x,n.z)||1;
  var on=data.parts[view.partOf[hit.triangle]].name;
  if(n.y>0.7)return {position:[p.x,p.y+SITTING_M,p.z],why:'0.75 m above "'+on+'"'};
  return {position:[p.x+HEAD_M*n.x/level,p.y,p.z+HEAD_M*n.z/level],
    why:'0.25 m before "'+on+'"'};
}
return {proposals:proposals,before:before};
})();
