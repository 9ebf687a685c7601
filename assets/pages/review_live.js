/* SPDX-License-Identifier: Apache-2.0 */
/* Move the sun over a sweep: its map shows the table's row of the sun that is pointed at, as it
   was judged; nothing is judged here. Without script maps and cards are complete. The numbers
   stand in the page, packed (review_live.h). */
(function(){
var block=document.getElementById('live-data');
if(!(block||window.liveData)||!window.DecompressionStream||!window.Blob)return;
var data=window.liveData||JSON.parse(block.textContent);

/* ---- numbers ---- */
function bytesOf(text){
  var digits=atob(text),out=new Uint8Array(digits.length);
  for(var i=0;i<out.length;i++)out[i]=digits.charCodeAt(i);
  return out;
}
/* The reverse of page_data.h: planes of differences, lowest bytes first. */
async function unpack(text,count,bytes){
  var stream=new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream('deflate'));
  var planes=new Uint8Array(await new Response(stream).arrayBuffer());
  var out=new Uint32Array(count);
  for(var plane=0;plane<bytes;plane++)
    for(var i=0,at=plane*count,value=0;i<count;i++,at++){
      value=value+planes[at]&255;
      out[i]|=value<<8*plane;
    }
  return out;
}
async function unpackLog(text,count){
  var codes=await unpack(text,count,2),out=new Float32Array(count),scale=Math.log(1e15)/65533;
  for(var i=0;i<count;i++)
    out[i]=codes[i]===65535?Infinity:codes[i]?1e-6*Math.exp((codes[i]-1)*scale):0;
  return out;
}
/* Three digits and more. */
function figure(v){
  if(!isFinite(v))return '∞';
  var size=Math.abs(v);
  if(size>=1e6)return (v/1e6).toPrecision(3)+' million';
  if(size>=1000)return Math.round(v).toString().replace(/\B(?=(\d{3})+$)/g,' ');
  return size===0?'0':size>=100?v.toFixed(0):size<0.01?v.toPrecision(2):v.toPrecision(3);
}

/* ---- verdicts, as they were judged ---- */
var HIDDEN=3;
var CHIPS=[['good','✓ passes'],['bad','✗ fails'],['close','≈ too close to call'],
  ['hidden','∅ cannot be judged']];
function percent(v){
  return (v<0?'−':'+')+Math.abs(100*v).toFixed(Math.abs(v)<0.1?1:0)+' %';
}

/* ---- parts of the page ---- */
function make(name,kind,text){
  var e=document.createElement(name);
  if(kind)e.className=kind;
  if(text)e.textContent=text;
  return e;
}
/* A labelled slider; words(value): what stands beside it. */
function slider(into,title,options,words,changed){
  var label=make('label','slide'),input=make('input'),said=make('output');
  input.type='range';
  ['min','max','step','value'].forEach(function(name){
    if(name in options)input.setAttribute(name,options[name]);
  });
  label.append(make('span','',title),said,input);
  into.append(label);
  var one={input:input,get:function(){return +input.value;},set:function(value){
    input.value=value;
    said.textContent=words(+input.value);
    input.setAttribute('aria-valuetext',said.textContent);
  }};
  input.addEventListener('input',function(){one.set(input.value);changed(+input.value);});
  one.set(options.value);
  return one;
}
function button(into,text,pressed){
  var b=make('button','plain',text);
  b.type='button';
  b.addEventListener('click',pressed);
  into.append(b);
  return b;
}
/* A row of the sweep's table: chip, contrast, margin; and a list of facts. */
function answer(){
  var box=make('div','live-answer');
  box.setAttribute('aria-live','polite');
  box.tell=function(row,facts,note){
    var chip=CHIPS[row.verdict],list=make('dl','facts'),said=make('p','live-said');
    said.append(make('span','chip '+chip[0],chip[1]),' ');
    if(row.verdict!==HIDDEN)
      said.append(make('b','',figure(row.contrast)+' : 1'),
        make('span','sub',figure(row.low)+' to '+figure(row.high)+
          (isNaN(row.margin)?', no limit asked':', margin '+percent(row.margin))));
    Object.keys(row).forEach(function(name){said.dataset[name]=row[name];});
    facts.forEach(function(fact){
      list.append(make('dt','',fact[0]),make('dd','',fact[1]));
    });
    box.replaceChildren(said,list);
    if(note)box.append(note);
  };
  return box;
}

/* ---- the suns of a condition, and what a sweep found of each ---- */
var skies=[];
async function skyOf(id){
  var s=data.skies[id],n=s.count;
  var azimuth=await unpack(s.azimuth,n,2),elevation=await unpack(s.elevation,n,2);
  var sky={count:n,year:s.year,minutes:s.minutes,headings:s.headings,
    azimuth:Float32Array.from(azimuth,function(v){return v/100;}),
    elevation:Float32Array.from(elevation,function(v){return v/100-90;})};
  if(!s.year)return sky;
  sky.step=await unpack(s.step,n,4);
  sky.heading=await unpack(s.heading,n,1);
  sky.days=new Date(Date.UTC(s.year,1,29)).getUTCMonth()===1?366:365;
  sky.stepsADay=Math.round(1440/s.minutes);
  sky.at=new Int32Array(sky.days*sky.stepsADay*s.headings.length).fill(-1);
  for(var i=0;i<n;i++)sky.at[sky.step[i]*s.headings.length+sky.heading[i]]=i;
  return sky;
}
var COLUMNS=['contrast','low','high','reflected','mirror','level','lux'];
async function sweepOf(found){
  if(!skies[found.sky])skies[found.sky]=skyOf(found.sky);
  var sky=await skies[found.sky],n=sky.count,sweep={found:found,sky:sky};
  for(var i=0;i<COLUMNS.length;i++){
    var name=COLUMNS[i],text=found[name]; /* or the number of the sweep that has the same */
    if(typeof text==='number')text=data.sweeps[text][name];
    sweep[name]=await unpackLog(text,n);
  }
  sweep.margin=Float32Array.from(await unpack(found.margin,n,2),function(v){
    return v?(v-1)/1000-1:NaN;
  });
  sweep.verdict=await unpack(found.verdict,n,1);
  return sweep;
}
function rowOf(sweep,i){
  var row={verdict:sweep.verdict[i],margin:sweep.margin[i]};
  COLUMNS.forEach(function(name){row[name]=sweep[name][i];});
  return row;
}

/* ---- the map ---- */
function turn(degrees){return degrees-360*Math.floor(degrees/360);}
function Map(area){
  var d=area.dataset;
  this.area=area;
  this.columns=+d.columns;this.rows=+d.rows;
  this.first=+d.first;this.step=+d.step;this.low=+d.low;this.rise=+d.rise;
  this.words=d.words.split('|');
}
/* Shares of the way from the left, and from below. */
Map.prototype.place=function(azimuth,elevation){
  var left=this.first-this.step/2;
  return [turn(azimuth-left)/this.step/this.columns,
    ((elevation-this.low)/this.rise+0.5)/this.rows];
};
Map.prototype.sunAt=function(event){
  var box=this.area.getBoundingClientRect();
  var x=(event.clientX-box.left)/box.width,y=(box.bottom-event.clientY)/box.height;
  return [this.first+(x*this.columns-0.5)*this.step,this.low+(y*this.rows-0.5)*this.rise];
};
function nearest(sky,azimuth,elevation){
  var best=-1,least=Infinity,narrow=Math.cos(elevation*Math.PI/180);
  for(var i=0;i<sky.count;i++){
    var across=(turn(sky.azimuth[i]-azimuth+180)-180)*narrow,up=sky.elevation[i]-elevation;
    var distance=across*across+up*up;
    if(distance<least){least=distance;best=i;}
  }
  return best;
}

/* ---- words ---- */
var MONTHS=['January','February','March','April','May','June','July','August','September',
  'October','November','December'];
function dayWords(sky,day){
  var date=new Date(Date.UTC(sky.year,0,1+day));
  return date.getUTCDate()+' '+MONTHS[date.getUTCMonth()];
}
function clockWords(minutes){
  return Math.floor(minutes/60)+':'+('0'+Math.floor(minutes%60)).slice(-2)+' UTC';
}

/* ---- one sweep ---- */
function Panel(sweep,section,map){
  var panel=this;
  this.sweep=sweep;this.sky=sweep.sky;this.map=map;this.at=-1;
  this.box=make('div','live');
  this.box.setAttribute('role','group');
  this.box.setAttribute('aria-label','Move the sun');
  this.controls=make('div','live-controls');
  this.answer=answer();
  this.box.append(make('h4','','Move the sun'),this.controls,this.answer);
  section.querySelector('.sweeps').insertAdjacentElement('afterend',this.box);
  if(this.sky.year)this.addTimes(section);
  else this.addAngles();
  var buttons=make('div','live-buttons');
  this.controls.append(buttons);
  button(buttons,'Worst sun',function(){panel.move(sweep.found.worst);});
  this.addSun();
  this.addPictures();
  this.move(sweep.found.worst);
}
Panel.prototype.addAngles=function(){
  var panel=this,map=this.map,last=map.first+(map.columns-1)*map.step;
  function moved(){panel.move(nearest(panel.sky,panel.azimuth.get(),panel.elevation.get()));}
  function degrees(v){return v.toFixed(1)+'°';}
  this.azimuth=slider(this.controls,'Azimuth of the sun',
    {min:map.first,max:last,step:map.step,value:map.first},degrees,moved);
  this.elevation=slider(this.controls,'Height of the sun',
    {min:map.low,max:map.low+(map.rows-1)*map.rise,step:map.rise,value:map.low},degrees,moved);
};
Panel.prototype.addTimes=function(section){
  var panel=this,sky=this.sky;
  function moved(){panel.moveTo(panel.day.get(),panel.hour.get(),+panel.heading.value);}
  this.day=slider(this.controls,'Day',{min:0,max:sky.days-1,step:1,value:0},
    function(v){return dayWords(sky,v);},moved);
  this.hour=slider(this.controls,'Hour',{min:0,max:sky.stepsADay-1,step:1,value:0},
    function(v){return clockWords((v+0.5)*sky.minutes);},moved);
  var label=make('label','slide'),select=make('select');
  sky.headings.forEach(function(heading,i){
    var option=make('option','',heading+'°');
    option.value=i;
    select.append(option);
  });
  label.append(make('span','','Heading'),select);
  this.controls.append(label);
  select.addEventListener('change',moved);
  this.heading=select;
  this.path=document.createElementNS('http://www.w3.org/2000/svg','path');
  this.path.setAttribute('class','day');
  this.map.area.querySelector('svg.cells').append(this.path);
  this.calendar=section.querySelector('.area[data-kind=calendar]');
  if(!this.calendar)return;
  this.mark=make('i','live-mark');
  this.calendar.append(this.mark);
  follow(this.calendar,function(event){
    var box=panel.calendar.getBoundingClientRect();
    var x=(event.clientX-box.left)/box.width,y=(box.bottom-event.clientY)/box.height;
    var day=Math.floor(x*sky.days),step=Math.floor(y*sky.stepsADay);
    panel.moveTo(Math.min(Math.max(day,0),sky.days-1),
      Math.min(Math.max(step,0),sky.stepsADay-1),+panel.heading.value);
  });
};
/* Pressed and moved, by mouse, pen or finger. */
function follow(area,moved){
  var held=false;
  area.addEventListener('pointerdown',function(event){
    if(event.button)return;
    held=true;
    if(area.setPointerCapture)area.setPointerCapture(event.pointerId);
    moved(event);
  });
  area.addEventListener('pointermove',function(event){if(held)moved(event);});
  ['pointerup','pointercancel'].forEach(function(name){
    area.addEventListener(name,function(){held=false;});
  });
}
Panel.prototype.addSun=function(){
  var panel=this,sun=make('button','live-sun');
  sun.type='button';
  this.sun=sun;
  this.map.area.append(sun);
  follow(this.map.area,function(event){
    var at=panel.map.sunAt(event);
    panel.move(nearest(panel.sky,at[0],at[1]));
    sun.focus({preventScroll:true});
  });
  sun.addEventListener('keydown',function(event){
    var way={ArrowLeft:[-1,0],ArrowRight:[1,0],ArrowUp:[0,1],ArrowDown:[0,-1]}[event.key];
    if(!way)return;
    event.preventDefault();
    panel.step(way[0],way[1]);
  });
};
/* By keys: over the map by a cell; over a year by a step of time and
   by a day. */
Panel.prototype.step=function(right,up){
  var sky=this.sky,map=this.map;
  if(!sky.year){
    this.move(nearest(sky,sky.azimuth[this.at]+right*map.step,
      Math.max(sky.elevation[this.at]+up*map.rise,-90)));
    return;
  }
  var day=this.day.get()+up,hour=this.hour.get()+right;
  if(hour<0||hour>=sky.stepsADay){day+=right;hour-=right*sky.stepsADay;}
  this.moveTo((day+sky.days)%sky.days,hour,+this.heading.value);
};
/* Suns of which there is a picture, by the same eye. */
Panel.prototype.addPictures=function(){
  var panel=this;
  this.seen=this.sweep.found.seen.map(function(one){
    var ring=make('i','live-ring'),place=panel.map.place(one[1],one[2]);
    ring.style.left=100*place[0]+'%';
    ring.style.bottom=100*place[1]+'%';
    ring.title='there is a picture of this sun';
    panel.map.area.append(ring);
    return {card:one[0],at:nearest(panel.sky,one[1],one[2])};
  });
};
Panel.prototype.move=function(i){
  var sky=this.sky;
  if(i<0)return;
  if(sky.year){
    this.moveTo(Math.floor(sky.step[i]/sky.stepsADay),sky.step[i]%sky.stepsADay,
      sky.heading[i]);
    return;
  }
  this.at=i;
  this.azimuth.set(this.map.first+
    turn(sky.azimuth[i]-this.map.first+this.map.step/2)-this.map.step/2);
  this.elevation.set(sky.elevation[i]);
  this.show();
};
Panel.prototype.moveTo=function(day,hour,heading){
  var sky=this.sky;
  this.day.set(day);
  this.hour.set(hour);
  this.heading.value=heading;
  this.at=sky.at[(day*sky.stepsADay+hour)*sky.headings.length+heading];
  this.path.setAttribute('d',this.pathOf(day,heading));
  if(this.mark){
    this.mark.style.left=100*(day+0.5)/sky.days+'%';
    this.mark.style.bottom=100*(hour+0.5)/sky.stepsADay+'%';
  }
  this.show();
};
Panel.prototype.pathOf=function(day,heading){
  var sky=this.sky,d='',last=null;
  for(var hour=0;hour<sky.stepsADay;hour++){
    var i=sky.at[(day*sky.stepsADay+hour)*sky.headings.length+heading];
    if(i<0)continue;
    var place=this.map.place(sky.azimuth[i],sky.elevation[i]);
    d+=(last!==null&&Math.abs(place[0]-last)<0.5?'L':'M')+
      (place[0]*this.map.columns).toFixed(2)+' '+((1-place[1])*this.map.rows).toFixed(2);
    last=place[0];
  }
  return d;
};
Panel.prototype.where=function(){
  var sky=this.sky,azimuth=turn(sky.azimuth[this.at]);
  return sky.elevation[this.at].toFixed(1)+'° high, '+
    this.map.words[Math.round(azimuth/45)%8]+', azimuth '+azimuth.toFixed(1)+'°';
};
Panel.prototype.link=function(){
  for(var i=0;i<this.seen.length;i++)
    if(this.seen[i].at===this.at){
      var link=make('a','','Look at the picture of this sun');
      link.href=(document.getElementById(this.seen[i].card)?'':
        /cases\.html$/.test(location.pathname)?'index.html':'cases.html')+
        '#'+this.seen[i].card;
      return link;
    }
  return null;
};
Panel.prototype.show=function(){
  var sun=this.sun,i=this.at;
  sun.hidden=i<0;
  this.answer.dataset.sun=i;
  if(i<0){
    this.answer.replaceChildren(make('p','live-said','The sun is below the horizon: '+
      'not judged.'));
    return;
  }
  var place=this.map.place(this.sky.azimuth[i],this.sky.elevation[i]);
  var row=rowOf(this.sweep,i);
  sun.style.left=100*place[0]+'%';
  sun.style.bottom=100*place[1]+'%';
  sun.setAttribute('aria-label','The sun: '+this.where()+'; arrow keys move it');
  this.answer.tell(row,[
    ['Sun',this.where()],
    ['On the display',figure(row.lux)+' lx'],
    ['Reflected',figure(row.reflected)+' cd/m², of it the sun as in a mirror '+
      figure(row.mirror)],
    ['Level',(100*row.level).toPrecision(3)+' % of what was measured']],this.link());
};

/* ---- all sweeps, each when it comes into sight ---- */
function begin(found){
  var card=document.getElementById('s'+found.id),section=card&&card.closest('section');
  var area=section&&section.querySelector('.area[data-kind=map]');
  if(!area)return;
  whenSeen(area,function(){
    sweepOf(found).then(function(sweep){
      if(sweep.sky.count)new Panel(sweep,section,new Map(area));
    });
  });
}
function whenSeen(element,act){
  if(!window.IntersectionObserver){act();return;}
  var watch=new IntersectionObserver(function(seen){
    if(!seen.some(function(one){return one.isIntersecting;}))return;
    watch.disconnect();
    act();
  },{rootMargin:'400px'});
  watch.observe(element);
}
data.sweeps.forEach(begin);
})();
