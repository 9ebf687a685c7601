/* SPDX-License-Identifier: Apache-2.0 */
/* From a triangle that was clicked to the rectangle of a display: all of its part that hangs
   together with it and lies as it does, and the upright rectangle around that. */
var equipFace=(function(){
var view=equipView,LIKE=Math.cos(5*Math.PI/180),LEVEL=0.99;
var STEPS=128; /* of the grid that finds what fits inside */

function corner(vertex){
  var p=view.position;
  return new THREE.Vector3(p[3*vertex],p[3*vertex+1],p[3*vertex+2]);
}
function normalOf(t){
  var i=view.index,a=corner(i[3*t]);
  return corner(i[3*t+1]).sub(a).cross(corner(i[3*t+2]).sub(a));
}
/* Corners at one place are one, also where a seam of texture coordinates parts them. */
function placeOf(vertex){
  var s=view.steps;
  return s[0][vertex]+'|'+s[1][vertex]+'|'+s[2][vertex];
}
function neighbours(part){
  var at=new Map();
  for(var t=part.first;t<part.first+part.count;t++)
    for(var k=0;k<3;k++){
      var place=placeOf(view.index[3*t+k]);
      if(!at.has(place))at.set(place,[]);
      at.get(place).push(t);
    }
  return at;
}
/* Within 5 degrees of the first one, whichever way they are wound. */
function flood(first){
  var part=view.data.parts[view.partOf[first]],at=neighbours(part);
  var along=normalOf(first).normalize(),seen=new Set([first]),found=[first];
  for(var i=0;i<found.length;i++)
    for(var k=0;k<3;k++)
      for(var t of at.get(placeOf(view.index[3*found[i]+k]))){
        if(seen.has(t))continue;
        seen.add(t);
        var n=normalOf(t),length=n.length();
        if(!length||Math.abs(n.dot(along))>=LIKE*length)found.push(t);
      }
  return found;
}
/* The sum of the areas as vectors, all on the side of whoever clicked. */
function meanNormal(triangles,towards){
  var sum=new THREE.Vector3();
  for(var t of triangles){
    var n=normalOf(t);
    sum.addScaledVector(n,n.dot(towards)<0?-1:1);
  }
  return sum.normalize();
}
/* Right is level; of a face that lies flat, it is the viewer's right. */
function axes(normal,from,middle){
  var up=new THREE.Vector3(0,1,0);
  if(Math.abs(normal.y)>LEVEL){
    up=middle.clone().sub(from).setY(0);
    if(!up.length())up.set(0,0,-1);
    if(normal.y<0)up.negate();
  }
  var right=up.cross(normal).normalize();
  return {right:right,up:normal.clone().cross(right).normalize()};
}
/* Which corners of a grid over the unit square lie in one of the triangles. */
function covered(flat){
  var wide=STEPS+1,found=new Uint8Array(wide*wide),rim=1e-3;
  flat.forEach(function(p){
    var d=(p[1][0]-p[0][0])*(p[2][1]-p[0][1])-(p[2][0]-p[0][0])*(p[1][1]-p[0][1]);
    if(!d)return;
    var from=[0,1].map(function(i){
      return Math.max(0,Math.ceil((Math.min(p[0][i],p[1][i],p[2][i])-rim)*STEPS));
    }),to=[0,1].map(function(i){
      return Math.min(STEPS,Math.floor((Math.max(p[0][i],p[1][i],p[2][i])+rim)*STEPS));
    });
    for(var y=from[1];y<=to[1];y++)
      for(var x=from[0];x<=to[0];x++){
        var s=x/STEPS-p[0][0],t=y/STEPS-p[0][1];
        var b=(s*(p[2][1]-p[0][1])-t*(p[2][0]-p[0][0]))/d;
        var c=(t*(p[1][0]-p[0][0])-s*(p[1][1]-p[0][1]))/d;
        if(b>=-rim&&c>=-rim&&b+c<=1+rim)found[y*wide+x]=1;
      }
  });
  return found;
}
/* The largest rectangle of cells whose four corners are covered: over each row, bars of covered
   cells, of which the largest rectangle is kept by a stack. */
function largest(found){
  var wide=STEPS+1,high=new Uint16Array(wide),best={area:0};
  for(var y=0;y<STEPS;y++){
    var stack=[];
    for(var x=0;x<=STEPS;x++){
      var at=y*wide+x,is=x<STEPS&&found[at]&&found[at+1]&&found[at+wide]&&found[at+wide+1];
      high[x]=is?high[x]+1:0;
      var left=x;
      while(stack.length&&stack[stack.length-1].high>=high[x]){
        var bar=stack.pop(),area=bar.high*(x-bar.left);
        left=bar.left;
        if(area>best.area)best={area:area,left:left,right:x,bottom:y+1-bar.high,top:y+1};
      }
      stack.push({left:left,high:high[x]});
    }
  }
  return best;
}
/* The largest one around a cell: of every pair of rows below and above it, what all rows between
   them have covered on both sides. */
function around(found,cell){
  var wide=STEPS+1,best={area:0};
  function reach(y){
    function is(x){
      var at=y*wide+x;
      return x>=0&&x<STEPS&&found[at]&&found[at+1]&&found[at+wide]&&found[at+wide+1];
    }
    if(y<0||y>=STEPS||!is(cell[0]))return null;
    var left=cell[0],right=cell[0]+1;
    while(is(left-1))left--;
    while(is(right))right++;
    return [left,right];
  }
  var low=[0,STEPS],bottom=cell[1];
  for(var r=reach(bottom);r;r=reach(--bottom)){
    low=[Math.max(low[0],r[0]),Math.min(low[1],r[1])];
    var both=low,top=cell[1];
    for(r=reach(top);r;r=reach(++top)){
      both=[Math.max(both[0],r[0]),Math.min(both[1],r[1])];
      var area=(both[1]-both[0])*(top+1-bottom);
      if(area>best.area)best={area:area,left:both[0],right:both[1],bottom:bottom,top:top+1};
    }
  }
  return best;
}
/* Corners of the grid in a rectangle, {low, high} in shares of the face, are not free. */
function strike(found,box){
  for(var y=0;y<=STEPS;y++)
    for(var x=0;x<=STEPS;x++)
      if(x/STEPS>box.low[0]&&x/STEPS<box.high[0]&&y/STEPS>box.low[1]&&y/STEPS<box.high[1])
        found[y*(STEPS+1)+x]=0;
}
/* The upright rectangle that fits into the face, within 1/128 of its size; null: none does.
   free: {at: a point in it, taken: rectangles beside it}; without it the largest. */
function inside(triangles,centre,a,width,height,free){
  function share(p){
    var d=p.clone().sub(centre);
    return [d.dot(a.right)/width+0.5,d.dot(a.up)/height+0.5];
  }
  var found=covered(triangles.map(function(t){
    return [0,1,2].map(function(k){return share(corner(view.index[3*t+k]));});
  })),best;
  if(free){
    free.taken.forEach(function(corners){
      var s=corners.map(share);
      strike(found,{low:[0,1].map(function(i){return Math.min(...s.map(function(c){return c[i];}));}),
        high:[0,1].map(function(i){return Math.max(...s.map(function(c){return c[i];}));})});
    });
    best=around(found,share(free.at).map(function(s){return Math.floor(s*STEPS);}));
  }else best=largest(found);
  if(!best.area)return null;
  return {dx:width*((best.left+best.right)/2/STEPS-0.5),
    dy:height*((best.bottom+best.top)/2/STEPS-0.5),
    width:width*(best.right-best.left)/STEPS,height:height*(best.top-best.bottom)/STEPS};
}
/* ---- a face that is curved or cut out: its own triangles ---- */
var SMOOTH=Math.cos(20*Math.PI/180),ROUND=Math.cos(80*Math.PI/180);
/* From triangle to triangle over their edges, as long as it bends by less than 20 degrees there
   and by less than 80 in all. Returns [[triangle, 1 or -1: its winding is the first's]]. */
function smoothFlood(hit){
  var part=view.data.parts[view.partOf[hit.triangle]],at=neighbours(part);
  var first=normalOf(hit.triangle).normalize(),sign=first.dot(hit.normal)<0?-1:1;
  var normals=new Map([[hit.triangle,first.multiplyScalar(sign)]]);
  var found=[[hit.triangle,sign]];
  function places(t){
    return [0,1,2].map(function(k){return placeOf(view.index[3*t+k]);});
  }
  for(var i=0;i<found.length;i++){
    var own=places(found[i][0]),n=normals.get(found[i][0]);
    for(var t of new Set(own.flatMap(function(p){return at.get(p);}))){
      if(normals.has(t)||places(t).filter(function(p){return own.includes(p);}).length<2)continue;
      var m=normalOf(t),length=m.length();
      if(!length)continue;
      var way=m.dot(n)<0?-1:1;
      m.multiplyScalar(way/length);
      if(m.dot(n)<SMOOTH||m.dot(normals.get(hit.triangle))<ROUND)continue;
      normals.set(t,m);
      found.push([t,way]);
    }
  }
  return found;
}
/* Along one axis: the length of the mean profile up to a place, so that a picture keeps its
   measure on what is bent about one axis. Exact there; on a dome it is a mean. */
function lengthAlong(places,heights){
  var order=places.map(function(x,i){return [x,heights[i]];})
    .sort(function(a,b){return a[0]-b[0];});
  var least=order[0][0],most=order[order.length-1][0],near=(most-least)/256||1e-9,knots=[];
  order.forEach(function(p){
    var last=knots[knots.length-1];
    if(last&&p[0]-last.from<=near){last.sum+=p[1];last.x+=p[0];last.count++;}
    else knots.push({from:p[0],x:p[0],sum:p[1],count:1});
  });
  knots.forEach(function(k){k.x/=k.count;k.z=k.sum/k.count;k.s=0;});
  for(var i=1;i<knots.length;i++)
    knots[i].s=knots[i-1].s+Math.hypot(knots[i].x-knots[i-1].x,knots[i].z-knots[i-1].z);
  return {whole:knots[knots.length-1].s||most-least||1e-9,to:function(x){
    var i=knots.findIndex(function(k){return k.x>=x;});
    if(i<=0)return i<0?knots[knots.length-1].s:0;
    var a=knots[i-1],b=knots[i];
    return a.s+(b.s-a.s)*(x-a.x)/(b.x-a.x||1);
  }};
}
/* Corners, each once, pushed out along their mean normals. */
function surfaceMesh(found,axes,before){
  var ids=new Map(),points=[],normals=[],triangles=[];
  found.forEach(function(f){
    var n=normalOf(f[0]).multiplyScalar(f[1]),own=[0,1,2].map(function(k){
      var v=view.index[3*f[0]+k],place=placeOf(v);
      if(!ids.has(place)){
        ids.set(place,points.length);
        points.push(corner(v));
        normals.push(new THREE.Vector3());
      }
      normals[ids.get(place)].add(n);
      return ids.get(place);
    });
    triangles.push(own[0],f[1]>0?own[1]:own[2],f[1]>0?own[2]:own[1]);
  });
  var centre=points[0],flat=points.map(function(p){
    var d=p.clone().sub(centre);
    return [d.dot(axes.right),d.dot(axes.up),d.dot(axes.normal)];
  });
  var column=function(i){return flat.map(function(p){return p[i];});};
  var s=lengthAlong(column(0),column(2)),t=lengthAlong(column(1),column(2));
  return {width:s.whole,height:t.whole,triangles:triangles,
    positions:points.flatMap(function(p,i){
      var q=p.clone().addScaledVector(normals[i].normalize(),before);
      return [q.x,q.y,q.z];
    }),
    uv:flat.flatMap(function(p){return [s.to(p[0])/s.whole,1-t.to(p[1])/t.whole];})};
}
/* before: so far before the face, m. */
function surface(hit,before){
  var found=smoothFlood(hit),normal=new THREE.Vector3();
  found.forEach(function(f){normal.addScaledVector(normalOf(f[0]),f[1]);});
  normal.normalize();
  return surfaceMesh(found,Object.assign({normal:normal},axes(normal,hit.from,hit.point)),before);
}
function fit(hit){
  var triangles=flood(hit.triangle);
  var normal=meanNormal(triangles,hit.normal);
  var a=axes(normal,hit.from,hit.point),low=[Infinity,Infinity],high=[-Infinity,-Infinity];
  var deep=-Infinity;
  for(var t of triangles)
    for(var k=0;k<3;k++){
      var d=corner(view.index[3*t+k]).sub(hit.point);
      [a.right,a.up].forEach(function(axis,i){
        low[i]=Math.min(low[i],d.dot(axis));
        high[i]=Math.max(high[i],d.dot(axis));
      });
      deep=Math.max(deep,d.dot(normal));
    }
  var centre=hit.point.clone().addScaledVector(a.right,(low[0]+high[0])/2)
    .addScaledVector(a.up,(low[1]+high[1])/2).addScaledVector(normal,deep);
  return {on:view.data.parts[view.partOf[hit.triangle]].name,triangles:triangles.length,
    centre:centre,right:a.right,up:a.up,width:high[0]-low[0],height:high[1]-low[1],
    surface:function(before){return surface(hit,before);},
    inside:function(free){
      return inside(triangles,centre,a,high[0]-low[0],high[1]-low[1],free);
    }};
}
return {fit:fit,surface:surface};
})();
